/* SPDX-License-Identifier: Apache-2.0 */
/* The steps of `parhelion equip`'s page: displays, eyes, materials, the review, and the file
   that all of it goes into (assets/schemas/equip.schema.json). */
(function(){
var view=equipView,data=view.data;
/* kept: materials as a file that was opened has them, with figures of its own. */
var state={displays:[],eyes:[],as:{},kept:{},mode:'display',chosen:null,
  lit:null};
var proposals=[],pictures={},OWN='figures of its own';
function $(id){return document.getElementById(id);}
/* A name as it may be shown (print/printable.h); what is typed and saved stays as it is. */
function shown(text){
  return String(text).replace(
    /[\u0000-\u001f\u007f-\u009f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]/g,function(c){
      return '\\u'+c.charCodeAt(0).toString(16).toUpperCase().padStart(4,'0');});
}
function make(tag,attributes,text){
  var e=document.createElement(tag);
  for(var key in attributes||{})
    if(key in e&&typeof attributes[key]!=='string')e[key]=attributes[key];
    else e.setAttribute(key,key==='value'?attributes[key]:shown(attributes[key]));
  if(text!==undefined)e.textContent=shown(text);
  return e;
}
function say(text,isBad){
  $('hint').textContent=shown(text);
  $('hint').classList.toggle('bad',!!isBad);
}
function round(v){return Math.round(v*1e6)/1e6+0;}
function list(v){return v.isVector3?[round(v.x),round(v.y),round(v.z)]:v.map(round);}
function vector(p){return new THREE.Vector3(p[0],p[1],p[2]);}
/* The page is in the scene's coordinates, its file in the world's. */
function inWorld(p){return list(p).map(function(x,a){return round(x+data.origin[a]);});}
function fromWorld(p){return p.map(function(x,a){return x-data.origin[a];});}

/* ---- names: each means one thing ---- */
function isTaken(name,but){
  return state.displays.concat(state.eyes).some(function(x){return x!==but&&x.name===name;})||
    data.parts.some(function(p){return p.name===name;})||
    data.materials.some(function(m){return m.name===name;})||
    data.cameras.some(function(c){return c.name===name;});
}
function freeName(wish){
  var name=wish;
  for(var i=2;isTaken(name);i++)name=wish+' '+i;
  return name;
}
function nameField(item,after){
  var field=make('input',{type:'text','aria-label':'Name',value:item.name});
  field.addEventListener('input',function(){
    var name=field.value.trim(),bad=!name?'a name is wanted':isTaken(name,item)?
      'the model has that name already':'';
    field.setCustomValidity(bad);
    item.bad=bad&&'"'+name+'": '+bad;
    item.name=name;
    after();
  });
  return field;
}

/* ---- small controls ---- */
function numberField(label,get,set,step){
  var box=make('label',{},label+' '),field=make('input',{type:'number',step:'any'});
  field.value=get();
  field.dataset.step=step;
  field.addEventListener('input',function(){
    if(!isFinite(field.valueAsNumber))return;
    set(field.valueAsNumber);
    changed();
  });
  field.addEventListener('keydown',function(e){
    if(e.key!=='ArrowUp'&&e.key!=='ArrowDown')return;
    e.preventDefault();
    field.value=+((field.valueAsNumber||0)+(e.key==='ArrowUp'?step:-step)).toFixed(6);
    field.dispatchEvent(new Event('input'));
  });
  box.append(field);
  return box;
}
function choice(label,words,value,set){
  var box=make('label',{},label+' '),select=make('select');
  words.forEach(function(w){select.append(make('option',{value:w[0]},w[1]));});
  select.value=value;
  select.addEventListener('change',function(){set(select.value);changed();});
  box.append(select);
  return box;
}
/* One of those that ship, or a path beside the model. */
function fileChoice(label,names,none,item,key){
  var words=names.map(function(n){return [n,n];}).concat(none?[['',none]]:[],
    [['*','a file of your own ...']]);
  var isOwn=item[key]&&!names.includes(item[key]);
  var box=choice(label,words,isOwn?'*':item[key],function(v){
    own.hidden=v!=='*';
    item[key]=v==='*'?own.value:v;
  });
  var own=make('input',{type:'text',placeholder:'path, as seen from the model',
    'aria-label':label+': path',hidden:!isOwn,value:isOwn?item[key]:''});
  own.addEventListener('input',function(){item[key]=own.value.trim();changed();});
  box.append(own);
  return box;
}
function card(item,title,from){
  var box=make('div',{'class':'card'}),top=make('div',{'class':'top'});
  var away=make('button',{type:'button','class':'plain','aria-label':'Remove '+title},'Remove');
  box.classList.toggle('chosen',state.chosen===item);
  top.append(nameField(item,changed),away);
  away.addEventListener('click',function(){
    state.displays=state.displays.filter(function(x){return x!==item;});
    state.eyes=state.eyes.filter(function(x){return x!==item;});
    state.eyes.forEach(function(e){if(e.looks===item)e.looks=state.displays[0]||null;});
    rebuild();
  });
  box.append(top,make('p',{'class':'from'},from));
  return box;
}

/* ---- displays ---- */
/* The rectangle as it was fitted, moved and turned by the numbers. */
function frameOf(d){
  var a=d.turn_deg*Math.PI/180,n=d.right.clone().cross(d.up);
  return {normal:n,
    right:d.right.clone().multiplyScalar(Math.cos(a)).addScaledVector(d.up,Math.sin(a)),
    up:d.up.clone().multiplyScalar(Math.cos(a)).addScaledVector(d.right,-Math.sin(a)),
    centre:d.centre.clone().addScaledVector(d.right,d.dx).addScaledVector(d.up,d.dy)};
}
function defaultContent(){
  var used=state.displays.map(function(d){return d.content;});
  return ['cluster','centre','pfd','nav','engine'].find(function(n){
    return pictures[n]&&!used.includes(n);
  })||(data.contents[0]||{name:''}).name;
}
function addDisplay(fit){
  var same=state.displays.find(function(d){
    return d.on===fit.on&&d.centre.distanceTo(fit.centre)<0.001;
  });
  if(same){
    state.chosen=same;
    rebuild();
    say('"'+same.name+'" is there already.');
    return;
  }
  var content=defaultContent();
  var d={name:freeName(content||'display'),on:fit.on,centre:fit.centre,right:fit.right,
    up:fit.up,width:fit.width,height:fit.height,dx:0,dy:0,turn_deg:0,before_mm:0.5,level:1,
    inside:fit.inside,
    panel:data.panels.find(function(p){return /ips|oled/.test(p);})||data.panels[0]||'',
    content:content};
  state.displays.push(d);
  state.eyes.forEach(function(e){if(!e.looks)e.looks=d;});
  state.chosen=d;
  rebuild();
  say('"'+d.name+'" on '+d.on+': '+size(d)+'. Another click, another display.');
}
function size(d){
  return Math.round(1000*d.width)+' × '+Math.round(1000*d.height)+' mm';
}
function keepShape(d){
  var c=pictures[d.content];
  if(!c||!c.width)return;
  var shape=c.width/c.height;
  if(d.width>d.height*shape)d.width=d.height*shape;
  else d.height=d.width/shape;
  rebuild();
}
function goInside(d){
  var within=d.inside();
  if(!within){say('No upright rectangle fits into that face.',true);return;}
  Object.assign(d,within,{turn_deg:0});
  rebuild();
}
function mm(d,key){
  return [function(){return +(1000*d[key]).toFixed(3);},
    function(v){d[key]=v/1000;}];
}
function plain(d,key){return [function(){return d[key];},function(v){d[key]=v;}];}
function displayCard(d){
  var box=card(d,d.name,'on '+d.on);
  var fields=make('div',{'class':'fields'}),more=make('details',{'class':'more'});
  fields.append(fileChoice('Panel',data.panels,'',d,'panel'),
    fileChoice('Content',data.contents.map(function(c){return c.name;}),'none: full white',d,
      'content'),
    numberField('Width, mm',...mm(d,'width'),1),numberField('Height, mm',...mm(d,'height'),1));
  var fine=make('div',{'class':'fields'});
  fine.append(numberField('To the right, mm',...mm(d,'dx'),1),
    numberField('Up, mm',...mm(d,'dy'),1),
    numberField('Turn, °',...plain(d,'turn_deg'),1),
    numberField('Before the face, mm',...plain(d,'before_mm'),0.5),
    numberField('Level, 1 is full',...plain(d,'level'),0.1));
  var shape=make('button',{type:'button','class':'plain'},"The content's shape");
  var within=make('button',{type:'button','class':'plain',hidden:!d.inside},'Inside the face');
  shape.addEventListener('click',function(){keepShape(d);});
  within.addEventListener('click',function(){goInside(d);});
  more.append(make('summary',{},'Place it finely'),fine);
  box.append(fields,within,shape,more);
  return box;
}

/* ---- eyes ---- */
function addEye(p){
  var eye={name:freeName(p.name||'driver eye'),position:p.position.slice(),why:p.why,
    looks:state.displays[0]||null,gaze:p.gaze||null,ahead:p.ahead||null};
  state.eyes.push(eye);
  state.chosen=eye;
  if(p.ahead)$('forward').value=p.ahead.join(',');
  rebuild();
}
function ahead(){return $('forward').value.split(',').map(Number);}
/* While there is no display an eye looks ahead. */
function targetOf(eye){
  if(eye.looks)return frameOf(eye.looks).centre;
  return vector(eye.position).addScaledVector(vector(eye.gaze||eye.ahead||ahead()),0.7);
}
function lookThrough(eye){
  state.through=eye;
  view.look(vector(eye.position),targetOf(eye),60);
}
function eyeCard(eye){
  var box=card(eye,eye.name,eye.why),fields=make('div',{'class':'fields'});
  ['X','Y','Z'].forEach(function(axis,a){
    fields.append(numberField(axis+', m',function(){return inWorld(eye.position)[a];},
      function(v){eye.position[a]=v-data.origin[a];eye.why='set by hand';},0.01));
  });
  fields.append(choice('Looks at',state.displays.map(function(d,i){return [String(i),d.name];})
    .concat([['','straight ahead']]),String(Math.max(-1,state.displays.indexOf(eye.looks)))
    .replace('-1',''),function(v){eye.looks=v===''?null:state.displays[+v];}));
  var through=make('button',{type:'button','class':'plain'},'Look through it');
  through.addEventListener('click',function(){lookThrough(eye);});
  box.append(fields,through);
  return box;
}

/* ---- materials ---- */
function usual(name){return data.usual.find(function(u){return u.name===name;});}
/* Until something else is chosen. */
function keptOf(id){
  var kept=state.kept[id];
  return kept&&(kept.as||OWN)===state.as[id]?kept:null;
}
function colourOf(id){
  var m=data.materials[id];
  var kept=keptOf(id);
  if(state.lit===id)return view.LIT;
  if(kept&&kept.base_color)return kept.base_color;
  if(state.as[id])return usual(state.as[id]).base_color;
  return m.missing&&$('mark').checked?view.MARK:null;
}
function css(rgb){
  return 'rgb('+rgb.map(function(v){
    return Math.round(255*Math.pow(Math.max(0,Math.min(1,v)),1/2.2));
  }).join(',')+')';
}
function wearers(id){
  var names=[...new Set(data.parts.filter(function(p){return p.material===id;})
    .map(function(p){return p.name;}))];
  return names.slice(0,2).join(', ')+(names.length>2?' and '+(names.length-2)+' more':'');
}
/* Where a row's material is. */
function light(id){
  state.lit=id;
  view.paint(colourOf);
}
function materialRow(id){
  var m=data.materials[id],row=make('div',{'class':'material'}),swatch=make('b');
  var name=make('span',{},m.name),select=make('select',{'aria-label':'What '+m.name+' is'});
  var source=make('span',{'class':'source'});
  name.append(make('small',{},wearers(id)));
  select.append(make('option',{value:''},m.missing?'not said':'as the model says'));
  data.usual.forEach(function(u){select.append(make('option',{value:u.name},u.name));});
  if(state.kept[id]&&!state.kept[id].as)select.append(make('option',{value:OWN},OWN));
  select.value=state.as[id]||'';
  function show(){
    var u=usual(state.as[id]);
    state.lit=null;
    swatch.style.background=css(colourOf(id)||m.color);
    source.textContent=u?u.source:'';
    source.hidden=!u;
  }
  select.addEventListener('change',function(){
    state.as[id]=select.value;
    show();
    view.paint(colourOf);
    changed();
  });
  show();
  ['mouseenter','focusin'].forEach(function(name){
    row.addEventListener(name,function(){light(id);});
  });
  ['mouseleave','focusout'].forEach(function(name){
    row.addEventListener(name,function(){light(null);});
  });
  row.dataset.material=id;
  row.append(swatch,name,select,source);
  return row;
}
function showMaterials(){
  var rows=[];
  data.materials.forEach(function(m,id){
    var isWorn=data.parts.some(function(p){return p.material===id;});
    if(m.missing||state.as[id]||($('every').checked&&isWorn&&!m.display))
      rows.push(materialRow(id));
  });
  $('materials').replaceChildren(...rows);
}

/* ---- what stands in the model ---- */
function rectangle(d){
  var f=frameOf(d),group=new THREE.Group(),c=pictures[d.content];
  var geometry=new THREE.PlaneGeometry(d.width,d.height);
  var plane=new THREE.Mesh(geometry,new THREE.MeshBasicMaterial(
    c&&c.texture?{map:c.texture}:{color:0xffffff}));
  var edge=new THREE.LineSegments(new THREE.EdgesGeometry(geometry),
    new THREE.LineBasicMaterial({color:state.chosen===d?0xff8a1f:0x2f8fff}));
  group.add(plane,edge);
  group.matrixAutoUpdate=false;
  group.matrix.makeBasis(f.right,f.up,f.normal)
    .setPosition(f.centre.clone().addScaledVector(f.normal,d.before_mm/1000));
  return group;
}
function eyeMark(eye){
  var group=new THREE.Group(),at=vector(eye.position);
  var ball=new THREE.Mesh(new THREE.SphereGeometry(0.025,20,14),
    new THREE.MeshBasicMaterial({color:state.chosen===eye?0xff8a1f:0x2f8fff}));
  ball.position.copy(at);
  var line=new THREE.Line(new THREE.BufferGeometry().setFromPoints([at,targetOf(eye)]),
    new THREE.LineBasicMaterial({color:0x2f8fff}));
  group.add(ball,line);
  group.at=at;
  return group;
}
function mark(){
  view.marks.remove(...view.marks.children);
  state.displays.forEach(function(d){view.marks.add(rectangle(d));});
  state.eyes.forEach(function(e){view.marks.add(eyeMark(e));});
  view.draw();
}
view.onlook=function(camera){
  view.marks.children.forEach(function(g){
    if(g.at)g.visible=g.at.distanceTo(camera.position)>0.06;
  });
};

/* ---- the file ---- */
function displayOf(d){
  var f=frameOf(d),out={name:d.name,on:d.on,centre_m:inWorld(f.centre),right:list(f.right),
    up:list(f.up),width_m:round(d.width),height_m:round(d.height),before_mm:round(d.before_mm),
    panel:d.panel};
  if(d.content)out.content=d.content;
  out.level=round(d.level);
  return out;
}
function eyeOf(e){
  var out={name:e.name,position_m:inWorld(e.position)};
  if(e.looks)out.looks_at=e.looks.name;
  else out.target_m=inWorld(targetOf(e));
  out.proposed_from=e.why;
  return out;
}
function numbersOf(text){
  return text.split(/[,;\s]+/).filter(Boolean).map(Number);
}
function equipOf(){
  var out={equip:1,model:data.model};
  if(state.displays.length)out.displays=state.displays.map(displayOf);
  out.eyes=state.eyes.map(eyeOf);
  var ids=Object.keys(state.as).filter(function(id){return state.as[id];});
  if(ids.length)out.materials=ids.map(function(id){
    return keptOf(id)||{index:+id,name:data.materials[id].name,as:state.as[id]};
  });
  out.profile=$('profile').value;
  out.forward=ahead();
  if($('has-place').checked)out.place={where:['lat','lon','alt'].map(function(id){
    return $(id).valueAsNumber;
  }),year:$('year').valueAsNumber,headings_deg:numbersOf($('headings').value)};
  return out;
}
function lacks(){
  var out=[],headings=numbersOf($('headings').value);
  state.displays.concat(state.eyes).forEach(function(x){if(x.bad)out.push(x.bad);});
  if(!state.displays.length)out.push('no display yet: click a face');
  if(!state.eyes.length)out.push('no eye yet');
  state.displays.forEach(function(d){
    if(!d.panel)out.push('"'+d.name+'" has no panel');
    if(!d.content)out.push('"'+d.name+'" shows no content: there is nothing to read');
    if(!(d.width>=0.001&&d.height>=0.001))out.push('"'+d.name+'" is less than 1 mm wide');
  });
  if($('has-place').checked&&(!headings.length||headings.some(function(h){
    return !(h>=0&&h<=360);
  })||['lat','lon','alt','year'].some(function(id){return !$(id).validity.valid||
    !isFinite($(id).valueAsNumber);})))out.push('the place: a number is out of range');
  return out;
}
function save(){
  var text=JSON.stringify(equipOf(),null,1)+'\n';
  var link=make('a',{download:fileName(),
    href:URL.createObjectURL(new Blob([text],{type:'application/json'}))});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(function(){URL.revokeObjectURL(link.href);},10000);
}
function stem(){return data.model.replace(/\.[^.]*$/,'');}
function fileName(){return stem()+'.equip.json';}
function quoted(word){return /^[\w.,\/-]+$/.test(word)?word:"'"+word.replace(/'/g,"'\\''")+"'";}

/* A file that was saved is taken up again. */
function take(saved){
  state.displays=(saved.displays||[]).map(function(d){
    return {name:d.name,on:d.on||'the model',centre:vector(fromWorld(d.centre_m)),right:vector(d.right),
      up:vector(d.up),width:d.width_m,height:d.height_m,dx:0,dy:0,turn_deg:0,
      before_mm:d.before_mm||0.5,level:'level' in d?d.level:1,panel:d.panel,
      content:d.content||''};
  });
  state.eyes=saved.eyes.map(function(e){
    var gaze=e.target_m?vector(e.target_m).sub(vector(e.position_m)).normalize():null;
    return {name:e.name,position:fromWorld(e.position_m),why:e.proposed_from||'as it was saved',
      gaze:gaze&&[gaze.x,gaze.y,gaze.z],
      looks:state.displays.find(function(d){return d.name===e.looks_at;})||null};
  });
  state.as={};
  state.kept={};
  (saved.materials||[]).forEach(function(m){
    if(!data.materials[m.index]||m.as&&!usual(m.as))return;
    state.as[m.index]=m.as||OWN;
    state.kept[m.index]=m;
  });
  $('profile').value=saved.profile||'iso-15008';
  var way=(saved.forward||[0,0,-1]).join(',');
  if(![...$('forward').options].some(function(o){return o.value===way;}))
    $('forward').append(make('option',{value:way},'('+way+')'));
  $('forward').value=way;
  $('has-place').checked=!!saved.place;
  if(saved.place){
    ['lat','lon','alt'].forEach(function(id,i){$(id).value=saved.place.where[i];});
    $('year').value=saved.place.year;
    $('headings').value=saved.place.headings_deg.join(', ');
  }
  showMaterials();
  view.paint(colourOf);
  rebuild();
}

/* ---- all of it ---- */
function changed(){
  var missing=lacks(),left=data.materials.filter(function(m,id){
    return m.missing&&!state.as[id];
  }).length;
  $('lacks').replaceChildren(...missing.map(function(t){return make('li',{},t);}));
  $('place').hidden=!$('has-place').checked;
  $('step-displays').classList.toggle('done',state.displays.length>0);
  $('step-eyes').classList.toggle('done',state.eyes.length>0);
  $('step-materials').classList.toggle('done',!left);
  $('step-review').classList.add('done');
  $('missing').textContent=!left?'Every material has data.':left>1?left+
    ' materials say nothing of what light does there: say what they are.':
    '1 material says nothing of what light does there: say what it is.';
  mark();
}
function rebuild(){
  $('displays').replaceChildren(...state.displays.map(displayCard));
  $('eyes').replaceChildren(...state.eyes.map(eyeCard));
  changed();
}
function setMode(mode){
  state.mode=mode;
  ['display','eye'].forEach(function(m){
    $('mode-'+m).setAttribute('aria-pressed',String(m===mode));
  });
  say(mode==='eye'?'Click a headrest, a cushion or a place before which the eye is.':
    'Click a face that is a display.');
}
view.onclick=function(hit){
  if(!hit){say('There is nothing under that place.',true);return;}
  if(state.mode==='display'){
    var fit=equipFace.fit(hit);
    if(fit.width<0.001||fit.height<0.001)say(fit.on+': that face is no area.',true);
    else addDisplay(fit);
    return;
  }
  var p=equipEye.before(hit),eye=state.eyes.includes(state.chosen)?state.chosen:state.eyes[0];
  if(eye){eye.position=p.position;eye.why=p.why;state.chosen=eye;rebuild();}
  else addEye(p);
  say('"'+state.chosen.name+'" is '+state.chosen.why+'.');
};
function offerProposals(){
  proposals=equipEye.proposals();
  proposals.forEach(function(p){
    var button=make('button',{type:'button',title:p.why},p.label);
    button.addEventListener('click',function(){addEye(p);lookThrough(state.chosen);});
    $('proposals').append(' ',button);
  });
}
function fill(){
  $('title').textContent='Equip '+shown(data.model);
  var long=Math.max(...data.high.map(function(h,a){return h-data.low[a];}));
  if(long>100||long<0.3)$('units').textContent='The model is '+long.toPrecision(3)+
    ' m long. glTF counts in metres: was it exported in another unit?';
  $('about').textContent=data.triangles.toLocaleString('en')+' triangles, '+data.parts.length+
    ' parts, '+data.high.map(function(h,a){return (h-data.low[a]).toFixed(2);}).join(' × ')+
    ' m';
  data.profiles.forEach(function(p){$('profile').append(make('option',{value:p},p));});
  $('profile').value='iso-15008';
  var own=data.materials.filter(function(m){return m.display;})
    .map(function(m){return m.name;});
  $('own-displays').textContent=own.length?'Displays already: '+
    shown(own.join(', '))+'.':'';
  $('command').textContent=shown(data.command+' --with '+quoted(fileName())+
    ' -o '+quoted(stem()+'.equipped.gltf'));
  data.contents.forEach(function(c){
    pictures[c.name]=c;
    if(!c.picture)return;
    c.texture=new THREE.TextureLoader().load(c.picture,view.draw);
    c.texture.encoding=THREE.sRGBEncoding;
    c.texture.minFilter=THREE.LinearFilter;
  });
}
function connect(){
  ['display','eye'].forEach(function(m){
    $('mode-'+m).addEventListener('click',function(){setMode(m);});
  });
  ['profile','has-place','lat','lon','alt','year','headings','forward'].forEach(function(id){
    $(id).addEventListener('input',changed);
  });
  $('mark').addEventListener('input',function(){view.paint(colourOf);showMaterials();});
  $('every').addEventListener('input',showMaterials);
  $('save').addEventListener('click',save);
  $('open').addEventListener('change',async function(e){
    try{
      take(JSON.parse(await e.target.files[0].text()));
      say('Taken up again.');
    }catch(fault){say('That file was not saved by this page: '+fault.message,true);}
  });
  $('view-all').addEventListener('click',function(){view.all(0.6,0.35);});
  $('view-top').addEventListener('click',function(){view.all(0,1.55);});
  $('view-eye').addEventListener('click',function(){
    var eye=state.eyes.includes(state.chosen)?state.chosen:state.eyes[0];
    if(eye)lookThrough(eye);
    else say('There is no eye yet.',true);
  });
  $('view-front').addEventListener('click',function(){
    var a=ahead();
    view.all(Math.atan2(-a[0],-a[2]),0.1);
  });
}
async function start(){
  try{await view.start();}
  catch(fault){
    say('The model cannot be shown here: '+fault.message+'. A browser with WebGL is wanted.',
      true);
    return;
  }
  fill();
  connect();
  offerProposals();
  view.paint(colourOf);
  view.all(0.6,0.35);
  if(proposals.length){addEye(proposals[0]);lookThrough(state.eyes[0]);}
  showMaterials();
  rebuild();
  setMode('display');
  window.parhelionEquip={ready:true,project:view.project,equip:equipOf};
}
start();
})();
