/* SPDX-License-Identifier: Apache-2.0 */
/* Displays in the page of `parhelion equip`: rectangles that were clicked or drawn, their
   numbers, and the handles by which they are moved, made larger, tilted and swivelled. A face
   that is curved or cut out may be the display itself. */
var equipDisplay=(function(){
var view=equipView,data=view.data,base=equipBase,state=base.state,pictures=base.pictures;
var make=base.make,say=base.say,round=base.round,list=base.list;
/* What is built: 5 mm to 1.5 m (display_frame.h). */
var LEAST_M=0.005,MOST_M=1.5,HANDLE_PIXELS=12,DEGREES_A_PIXEL=0.25,GAP=0.04;
/* Of a content's texts, the largest: as many as a review finds by itself. */
var READ_FIRST=6;
var RAD=Math.PI/180;

/* ---- where it is ---- */
/* The rectangle as it was fitted, then moved, turned in its plane, swivelled about its up and
   tilted about its right; it comes out of the face as far as it needs to. */
function frame(d){
  var n=d.right.clone().cross(d.up),a=d.turn_deg*RAD,s=d.swivel_deg*RAD,t=d.tilt_deg*RAD;
  var right=d.right.clone().multiplyScalar(Math.cos(a)).addScaledVector(d.up,Math.sin(a));
  var up=d.up.clone().multiplyScalar(Math.cos(a)).addScaledVector(d.right,-Math.sin(a));
  var lift=(Math.abs(Math.sin(s))*d.width+Math.abs(Math.sin(t))*d.height)/2;
  right=right.multiplyScalar(Math.cos(s)).addScaledVector(n,-Math.sin(s));
  var turned=right.clone().cross(up);
  up=up.multiplyScalar(Math.cos(t)).addScaledVector(turned,-Math.sin(t));
  return {right:right,up:up,normal:right.clone().cross(up),
    centre:d.centre.clone().addScaledVector(d.right,d.dx).addScaledVector(d.up,d.dy)
      .addScaledVector(n,d.out+lift)};
}
/* A place of it: x and y from -1 to 1. */
function placeOn(f,d,x,y){
  return f.centre.clone().addScaledVector(f.right,x*d.width/2)
    .addScaledVector(f.up,y*d.height/2);
}
function corners(d){
  var f=frame(d);
  return [[-1,-1],[1,-1],[1,1],[-1,1]].map(function(c){return placeOn(f,d,c[0],c[1]);});
}
/* Its middle is to be there. */
function moveTo(d,centre){
  var by=centre.clone().sub(frame(d).centre),n=d.right.clone().cross(d.up);
  d.dx+=by.dot(d.right);
  d.dy+=by.dot(d.up);
  d.out+=by.dot(n);
}
function size(d){
  return Math.round(1000*d.width)+' × '+Math.round(1000*d.height)+' mm';
}
function isOnFace(d,fit){
  var n=d.right.clone().cross(d.up),other=fit.right.clone().cross(fit.up);
  return d.on===fit.on&&n.dot(other)>0.9&&
    Math.abs(d.centre.clone().sub(fit.centre).dot(other))<0.02;
}
function holds(d,point){
  var f=frame(d),by=point.clone().sub(f.centre);
  return Math.abs(by.dot(f.right))<=d.width/2&&Math.abs(by.dot(f.up))<=d.height/2;
}

/* ---- new ones ---- */
function defaultContent(){
  var used=state.displays.map(function(d){return d.content;});
  return ['cluster','centre','pfd','nav','engine'].find(function(n){
    return pictures[n]&&!used.includes(n);
  })||(data.contents[0]||{name:''}).name;
}
/* What of its content is read, until it is unticked. Names mean one thing on a display. */
function takeTexts(d){
  var c=pictures[d.content];
  d.texts=((c&&c.texts)||[]).map(function(t,i){
    return {uv:t.uv,crop:t.crop,name:t.name||d.content+' '+(i+1),
      polarity:t.polarity,on:i<READ_FIRST};
  });
  d.texts.forEach(function(t,i){
    for(var n=2,wish=t.name;d.texts.slice(0,i).some(function(u){return u.name===t.name;});n++)
      t.name=wish+' '+n;
  });
}
function add(fit,place){
  var content=defaultContent();
  var d=Object.assign({name:base.freeName(content||'display'),on:fit.on,centre:fit.centre,
    right:fit.right,up:fit.up,width:fit.width,height:fit.height,dx:0,dy:0,out:0,turn_deg:0,
    tilt_deg:0,swivel_deg:0,before_mm:0.5,level:1,inside:fit.inside,surface:fit.surface,
    panel:data.panels.find(function(p){return /ips|oled/.test(p);})||data.panels[0]||'',
    content:content},place);
  takeTexts(d);
  state.displays.push(d);
  state.eyes.forEach(function(e){if(!e.looks)e.looks=d;});
  state.chosen=d;
  base.rebuild();
  say('"'+d.name+'" on '+d.on+': '+size(d)+'. Drag its handles; another click, another display.');
  return d;
}
/* A click beside the displays of a face takes what is free there. */
function click(hit){
  var fit=equipFace.fit(hit);
  if(fit.width<0.001||fit.height<0.001){say(fit.on+': that face is no area.',true);return;}
  var others=state.displays.filter(function(d){return isOnFace(d,fit);});
  var same=others.find(function(d){return d.mesh||holds(d,hit.point);});
  if(same){
    state.chosen=same;
    base.rebuild();
    say('"'+same.name+'" is chosen. Drag its handles, or divide it; a click beside it adds '+
      'another.');
    return;
  }
  add(fit,others.length?fit.inside({at:hit.point,taken:others.map(corners)}):null);
}
/* Two side by side, with a gap between them. */
function divide(d){
  var f=frame(d),width=d.width*(1-GAP)/2,apart=d.width*(1+GAP)/4,other=Object.assign({},d,{width:width,
    content:defaultContent(),name:''});
  other.name=base.freeName(other.content||d.name);
  d.width=other.width=width;
  moveTo(d,f.centre.clone().addScaledVector(f.right,-apart));
  moveTo(other,f.centre.clone().addScaledVector(f.right,apart));
  takeTexts(other);
  state.displays.push(other);
  state.chosen=other;
  base.rebuild();
}
/* The face as it is, curved or cut out; null: again a rectangle. */
function setShape(d,isFace){
  var mesh=isFace&&d.surface?d.surface(d.before_mm/1000):null;
  d.mesh=mesh;
  if(mesh){d.width=mesh.width;d.height=mesh.height;}
  base.rebuild();
}

/* ---- its card ---- */
function keepShape(d){
  var c=pictures[d.content];
  if(!c||!c.width)return;
  var shape=c.width/c.height;
  if(d.width>d.height*shape)d.width=d.height*shape;
  else d.height=d.width/shape;
  base.rebuild();
}
function goInside(d){
  var within=d.inside();
  if(!within){say('No upright rectangle fits into that face.',true);return;}
  Object.assign(d,within,{turn_deg:0,tilt_deg:0,swivel_deg:0,out:0});
  base.rebuild();
}
function mm(d,key){
  return [function(){return +(1000*d[key]).toFixed(3);},
    function(v){d[key]=v/1000;}];
}
function plain(d,key){return [function(){return +d[key].toFixed(4);},function(v){d[key]=v;}];}
function numbers(d){
  var field=base.numberField,fine=make('div',{'class':'fields'});
  fine.append(field('To the right, mm',...mm(d,'dx'),1),field('Up, mm',...mm(d,'dy'),1),
    field('Turn, °',...plain(d,'turn_deg'),1),
    field('Before the face, mm',...plain(d,'before_mm'),0.5),
    field('Tilt back, °',...plain(d,'tilt_deg'),1),
    field('Swivel to the right, °',...plain(d,'swivel_deg'),1),
    field('Level, 1 is as measured',...plain(d,'level'),0.05));
  return fine;
}
function plainButton(text,act,isHidden){
  var button=make('button',{type:'button','class':'plain',hidden:!!isHidden},text);
  button.addEventListener('click',function(e){e.stopPropagation();act();});
  return button;
}
/* Words of the content that are read, each by a picture of it. */
function textRows(d){
  var more=make('details',{'class':'more texts'}),rows=d.texts.map(function(t){
    var row=make('label',{'class':'found'}),tick=make('input',{type:'checkbox',checked:t.on,
      'aria-label':'Read '+t.name});
    var name=make('input',{type:'text',value:t.name,'aria-label':'Name of the text'});
    tick.addEventListener('change',function(){t.on=tick.checked;count();base.changed();});
    name.addEventListener('input',function(){t.name=name.value.trim();base.changed();});
    row.append(tick,make('img',{src:t.crop,alt:t.name}),name);
    return row;
  }),head=make('summary');
  function count(){
    head.textContent='Read: '+d.texts.filter(function(t){return t.on;}).length+' of '+
      d.texts.length+' texts';
  }
  count();
  more.append(head,...rows);
  more.open=!!d.textsOpen;
  more.addEventListener('toggle',function(){d.textsOpen=more.open;});
  return more;
}
function cardOf(d){
  var box=base.card(d,d.name,'on '+d.on),field=base.numberField,shown=d.content;
  var fields=make('div',{'class':'fields'}),more=make('details',{'class':'more'});
  fields.append(base.fileChoice('Panel',data.panels,'',d,'panel'),
    base.fileChoice('Content',data.contents.map(function(c){return c.name;}),
      'none: full white',d,'content'),
    field('Width, mm',...mm(d,'width'),1),field('Height, mm',...mm(d,'height'),1));
  fields.addEventListener('change',function(){
    if(d.content===shown)return;
    takeTexts(d);
    base.rebuild();
  });
  box.addEventListener('click',function(){
    if(state.chosen===d||!state.displays.includes(d))return;
    state.chosen=d;
    document.querySelectorAll('.card.chosen').forEach(function(c){c.classList.remove('chosen');});
    box.classList.add('chosen');
    base.changed();
  });
  more.append(make('summary',{},'Place it finely'),numbers(d));
  more.open=!!d.isOpen;
  more.addEventListener('toggle',function(){d.isOpen=more.open;});
  if(d.mesh)fields.querySelectorAll('input[type=number]').forEach(function(i){i.disabled=true;});
  box.append(fields,plainButton("The content's shape",function(){keepShape(d);},d.mesh),
    plainButton('Inside the face',function(){goInside(d);},!d.inside||d.mesh),
    plainButton('Divide',function(){divide(d);},d.mesh),
    plainButton(d.mesh?'A flat rectangle':'The face itself (curved, cut out)',
      function(){setShape(d,!d.mesh);},!d.surface&&!d.mesh));
  if(!d.mesh)box.append(more);
  if(d.texts&&d.texts.length)box.append(textRows(d));
  return box;
}

/* ---- how it is drawn ---- */
function pictureOf(d){
  var c=pictures[d.content];
  return new THREE.MeshBasicMaterial(c&&c.texture?{map:c.texture,side:THREE.DoubleSide}:
    {color:0xffffff,side:THREE.DoubleSide});
}
function edgeOf(d){
  return new THREE.LineBasicMaterial({color:state.chosen===d?0xff8a1f:0x2f8fff});
}
function faceMark(d){
  var group=new THREE.Group(),geometry=new THREE.BufferGeometry(),m=d.mesh;
  var uv=m.uv.map(function(v,i){return i%2?1-v:v;}); /* glTF's v runs down */
  geometry.setAttribute('position',new THREE.BufferAttribute(new Float32Array(m.positions),3));
  geometry.setAttribute('uv',new THREE.BufferAttribute(new Float32Array(uv),2));
  geometry.setIndex(m.triangles);
  group.add(new THREE.Mesh(geometry,pictureOf(d)),
    new THREE.LineSegments(new THREE.EdgesGeometry(geometry,30),edgeOf(d)));
  return group;
}
function mark(d){
  if(d.mesh)return faceMark(d);
  var f=frame(d),group=new THREE.Group(),geometry=new THREE.PlaneGeometry(d.width,d.height);
  group.add(new THREE.Mesh(geometry,pictureOf(d)),
    new THREE.LineSegments(new THREE.EdgesGeometry(geometry),edgeOf(d)));
  group.matrixAutoUpdate=false;
  group.matrix.makeBasis(f.right,f.up,f.normal)
    .setPosition(f.centre.clone().addScaledVector(f.normal,d.before_mm/1000));
  return group;
}

/* ---- handles ---- */
/* x, y: of the corner or side that is dragged, 0 0 the middle; kind "tilt" stands above it. */
function handlesOf(d){
  var f=frame(d),far=Math.max(0.02,0.2*Math.min(d.width,d.height)),out=[];
  [[0,0],[-1,-1],[1,-1],[1,1],[-1,1],[0,-1],[1,0],[0,1],[-1,0]].forEach(function(c){
    out.push({x:c[0],y:c[1],kind:c[0]||c[1]?'size':'move',at:placeOn(f,d,c[0],c[1])});
  });
  out.push({kind:'tilt',at:placeOn(f,d,0,1).addScaledVector(f.up,far)});
  return out;
}
function handleMarks(d){
  var list=handlesOf(d),group=new THREE.Group(),geometry=new THREE.BufferGeometry();
  var at=new Float32Array(3*list.length),colour=new Float32Array(3*list.length);
  list.forEach(function(h,i){
    at.set([h.at.x,h.at.y,h.at.z],3*i);
    colour.set(h.kind==='tilt'?[0.1,0.75,0.2]:[1,0.54,0.12],3*i);
  });
  geometry.setAttribute('position',new THREE.BufferAttribute(at,3));
  geometry.setAttribute('color',new THREE.BufferAttribute(colour,3));
  var points=new THREE.Points(geometry,new THREE.PointsMaterial({size:11,sizeAttenuation:false,
    vertexColors:THREE.VertexColors||true,depthTest:false,transparent:true}));
  var line=new THREE.Line(new THREE.BufferGeometry().setFromPoints([list[7].at,
    list[list.length-1].at]),new THREE.LineBasicMaterial({color:0x19bf33,depthTest:false}));
  points.renderOrder=line.renderOrder=10;
  group.add(line,points);
  return group;
}
var drag=null;
function under(x,y){
  var d=state.chosen,best=null,least=HANDLE_PIXELS;
  if(!state.displays.includes(d)||d.mesh)return null;
  handlesOf(d).forEach(function(h){
    var p=view.project([h.at.x,h.at.y,h.at.z]),far=Math.hypot(p[0]-x,p[1]-y);
    if(far<least){least=far;best=h;}
  });
  return best&&{d:d,handle:best};
}
/* The corner or side opposite to the one that is dragged stays. */
function resize(d,h,point){
  var f=frame(d),by=point.sub(f.centre),half=[d.width/2,d.height/2];
  var sides=[d.width,d.height],shift=[0,0];
  [h.x,h.y].forEach(function(way,i){
    if(!way)return;
    var reach=by.dot(i?f.up:f.right)*way;
    sides[i]=Math.max(0.001,reach+half[i]);
    shift[i]=way*(sides[i]/2-half[i]);
  });
  d.width=sides[0];
  d.height=sides[1];
  moveTo(d,f.centre.clone().addScaledVector(f.right,shift[0]).addScaledVector(f.up,shift[1]));
}
function within(v,most){return Math.max(-most,Math.min(most,v));}
function dragTo(x,y){
  var d=drag.d;
  if(drag.handle&&drag.handle.kind==='tilt'){
    d.tilt_deg=within(drag.tilt+DEGREES_A_PIXEL*(drag.y-y),80);
    d.swivel_deg=within(drag.swivel+DEGREES_A_PIXEL*(x-drag.x),80);
    say('"'+d.name+'": tilted back by '+d.tilt_deg.toFixed(1)+'°, swivelled to the right by '+
      d.swivel_deg.toFixed(1)+'°.');
  }else{
    var f=frame(d),point=view.onPlane(x,y,f.centre,f.normal);
    if(!point)return;
    if(drag.handle.kind==='move')moveTo(d,point);
    else resize(d,drag.handle,point);
    say('"'+d.name+'": '+size(d)+'.');
  }
  base.changed();
}

/* ---- drawn on a face ---- */
function startDrawing(x,y){
  var hit=view.pick(x,y),fit=hit&&equipFace.fit(hit);
  return fit?{fit:fit,from:hit.point,to:null,normal:fit.right.clone().cross(fit.up)}:null;
}
function drawn(){
  var by=drag.to.clone().sub(drag.from),right=by.dot(drag.fit.right),up=by.dot(drag.fit.up);
  var middle=drag.from.clone().addScaledVector(drag.fit.right,right/2)
    .addScaledVector(drag.fit.up,up/2);
  var from=middle.clone().sub(drag.fit.centre);
  return {width:Math.abs(right),height:Math.abs(up),dx:from.dot(drag.fit.right),
    dy:from.dot(drag.fit.up),out:from.dot(drag.normal)};
}
view.onpress=function(x,y){
  var found=under(x,y);
  if(found){
    var d=found.d;
    drag={d:d,handle:found.handle,x:x,y:y,tilt:d.tilt_deg,swivel:d.swivel_deg};
  }else drag=state.mode==='draw'?startDrawing(x,y):null;
  return !!drag;
};
view.ondrag=function(x,y){
  if(drag.d){dragTo(x,y);return;}
  drag.to=view.onPlane(x,y,drag.from,drag.normal);
  if(!drag.to)return;
  var r=drawn();
  say(drag.fit.on+': '+size(r)+'.');
  view.outline([[0,0],[1,0],[1,1],[0,1]].map(function(c){
    var by=drag.to.clone().sub(drag.from);
    return drag.from.clone().addScaledVector(drag.fit.right,c[0]*by.dot(drag.fit.right))
      .addScaledVector(drag.fit.up,c[1]*by.dot(drag.fit.up))
      .addScaledVector(drag.normal,0.002);
  }));
};
view.ondrop=function(){
  if(!drag.d&&drag.to){
    var r=drawn();
    view.outline(null);
    if(r.width>0.002&&r.height>0.002)add(drag.fit,r);
  }else base.rebuild();
  drag=null;
};

/* ---- the file ---- */
function saved(d){
  var f=frame(d),out={name:d.name,on:d.on,centre_m:base.inWorld(f.centre),right:list(f.right),
    up:list(f.up),width_m:round(d.width),height_m:round(d.height),before_mm:round(d.before_mm),
    panel:d.panel};
  if(d.content)out.content=d.content;
  out.level=round(d.level);
  if(d.max_level>1)out.max_level=d.max_level;
  if(d.any_size)out.any_size=true;
  if(d.mesh)out.mesh={positions_m:base.inWorld(d.mesh.positions),uv:list(d.mesh.uv),
    triangles:d.mesh.triangles};
  if(d.texts&&d.texts.length)out.symbols=d.texts.filter(function(t){return t.on;})
    .map(function(t){
      return Object.assign({name:t.name,uv:t.uv},t.polarity?{polarity:t.polarity}:{});
    });
  return out;
}
function isSame(a,b){
  return a.every(function(v,i){return Math.abs(v-b[i])<1e-6;});
}
function taken(d){
  var out={name:d.name,on:d.on||'the model',centre:base.vector(base.fromWorld(d.centre_m)),
    right:base.vector(d.right),up:base.vector(d.up),width:d.width_m,height:d.height_m,dx:0,dy:0,
    out:0,turn_deg:0,tilt_deg:0,swivel_deg:0,before_mm:d.before_mm||0.5,
    level:'level' in d?d.level:1,max_level:d.max_level,any_size:d.any_size,panel:d.panel,
    content:d.content||'',mesh:d.mesh?{positions:base.fromWorld(d.mesh.positions_m),uv:d.mesh.uv,
      triangles:d.mesh.triangles,width:d.width_m,height:d.height_m}:null};
  takeTexts(out);
  if(!d.symbols)return out;
  out.texts.forEach(function(t){
    var kept=d.symbols.find(function(s){return isSame(s.uv,t.uv);});
    t.on=!!kept;
    if(kept)t.name=kept.name;
  });
  d.symbols.forEach(function(s){
    if(!out.texts.some(function(t){return isSame(s.uv,t.uv);}))
      out.texts.push(Object.assign({crop:'',on:true},s));
  });
  return out;
}
function lacks(d){
  var out=[],name='"'+d.name+'" ';
  if(!d.panel)out.push(name+'has no panel');
  if(!d.content)out.push(name+'shows no content: there is nothing to read');
  [d.width,d.height].forEach(function(m){
    if(!d.any_size&&!(m>=LEAST_M&&m<=MOST_M))out.push(name+'is '+size(d)+': plausible are '+
      LEAST_M*1000+' to '+MOST_M*1000+' mm. Is the model in metres?');
  });
  if(!(d.level>=0&&d.level<=(d.max_level||1)))out.push(name+'has a level of '+d.level+
    ': 0 to 1 is required, 1 is as measured');
  if(d.texts&&d.texts.length&&!d.texts.some(function(t){return t.on;}))
    out.push(name+': no text of it is ticked, nothing of it is read');
  return [...new Set(out)];
}
return {frame:frame,click:click,card:cardOf,mark:mark,handleMarks:handleMarks,saved:saved,
  taken:taken,lacks:lacks,handlesOf:handlesOf};
})();
