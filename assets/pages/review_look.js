/* SPDX-License-Identifier: Apache-2.0 */
/* Look at a picture of a case: exposure, the displays' brightness, false colours with the value
   under the cursor, the light as the eye spreads it. Where the frame is denoised the plain
   picture shows that, labelled, and nothing else does: values are the frame's. The picture is added up of its layers
   (review_live.h) and shown as `parhelion develop` shows frames: assets/ocio/parhelion.ocio,
   view photographic. On paper, and without script, the frame's own picture stands there. */
(function(){
if(!liveTools)return;
var t=liveTools,make=t.make;
var INSET=0.05,OUTSET=1/17; /* what a channel gives to each other, and takes back */
var LUMINANCE=[0.2126,0.7152,0.0722];

/* ---- layers ---- */
/* XYZ to what goes into the view's curve: Rec.709, then the inset. */
function curveMatrix(){
  var M=[[3.2409699419,-1.53738317757,-0.498610760293],
    [-0.969243636281,1.87596750151,0.0415550574072],
    [0.055630079697,-0.203976958889,1.05697151424]];
  return M.map(function(row,i){
    return row.map(function(v,c){
      return (1-3*INSET)*v+INSET*(M[0][c]+M[1][c]+M[2][c]);
    });
  });
}
function steps(){
  var out=new Float32Array(4096),scale=Math.log(1e15)/4094;
  for(var i=1;i<4096;i++)out[i]=1e-5*Math.exp((i-1)*scale);
  return out;
}
async function layerOf(text,count){
  var codes=await t.unpack(text,count,4),Y=steps(),M=curveMatrix();
  var planes=[0,1,2,3].map(function(){return new Float32Array(count);});
  for(var i=0;i<count;i++){
    var code=codes[i],y=Y[code&4095],u=(code>>>16&255)/410,v=(code>>>24)/410;
    if(!y||!v)continue;
    var x=y*9*u/(4*v),z=y*(12-3*u-20*v)/(4*v);
    for(var c=0;c<3;c++)planes[c][i]=M[c][0]*x+M[c][1]*y+M[c][2]*z;
    planes[3][i]=y;
  }
  return planes;
}
/* A picture's layers stand in the page, or in a script beside it that hands them over by its
   own name. */
var handed={},scripts={};
window.liveLayers=function(name,layers){handed[name]=layers;};
function textsOf(picture){
  var name=picture.script;
  if(!name)return Promise.resolve(picture.layers);
  if(!scripts[name])
    scripts[name]=new Promise(function(done,failed){
      var script=make('script');
      script.onload=function(){done(handed[name]);};
      script.onerror=failed;
      script.src=name;
      document.head.append(script);
    });
  return scripts[name];
}
var loaded={};
var PLAIN=0,IN_EYE=2,CLEAN=4; /* first of both layers */
function layersOf(id,first){
  var key=id+':'+first,picture=t.data.pictures[id],count=picture.width*picture.height;
  if(!loaded[key])
    loaded[key]=textsOf(picture).then(function(texts){
      return Promise.all(texts.slice(first,first+2).map(function(text){
        return layerOf(text,count);
      }));
    });
  return loaded[key];
}

/* ---- tables: by the upper 17 bits of a float, 256 entries an octave ---- */
var TABLE=1<<17;
function entries(of){
  var bits=new Uint32Array(1),value=new Float32Array(bits.buffer);
  for(var i=0;i<TABLE;i++){
    bits[0]=i<<15|1<<14;
    of(i,value[0]);
  }
}
function curveTable(){
  var out=new Float32Array(TABLE);
  entries(function(i,x){
    out[i]=x>0?1.0059125/(1+0.58612272*Math.pow(x,-1.2)):0;
  });
  return out;
}
/* Codes of the display for 0 to 1 in FINE steps, from BELOW on: the outset leaves that range,
   by less than an eighth below and a fifth above. */
var FINE=4095,BELOW=512;
function srgbTable(){
  var out=new Uint8Array(8192);
  for(var i=0;i<8192;i++){
    var v=Math.min(Math.max((i-BELOW)/FINE,0),1);
    out[i]=Math.round(255*(v<=0.0031308?12.92*v:1.055*Math.pow(v,1/2.4)-0.055));
  }
  return out;
}
function colourTable(low,high){
  var colours=t.bytesOf(t.data.colours),out=new Uint32Array(TABLE),span=Math.log(high/low);
  entries(function(i,y){
    var place=y>0?Math.log(y/low)/span:0,at=3*Math.round(255*Math.min(Math.max(place,0),1));
    out[i]=255<<24|colours[at+2]<<16|colours[at+1]<<8|colours[at];
  });
  return out;
}
var curve=null,srgb=null;

/* ---- drawing ---- */
function Drawing(canvas,picture){
  this.canvas=canvas;this.picture=picture;
  canvas.width=picture.width;canvas.height=picture.height;
  this.context=canvas.getContext('2d',{alpha:false});
  this.image=this.context.createImageData(picture.width,picture.height);
  this.pixels=new Uint32Array(this.image.data.buffer);
  this.sum=new Float32Array(3*picture.width);
  this.bits=new Uint32Array(this.sum.buffer);
}
Drawing.prototype.finish=function(){this.context.putImageData(this.image,0,0);};
/* The view's curve, then the outset and the display's own. */
Drawing.prototype.light=function(layers,share,gain){
  var a=layers[0],b=layers[1],width=this.picture.width,sum=this.sum,bits=this.bits;
  var r0=a[0],g0=a[1],b0=a[2],r1=b[0],g1=b[1],b1=b[2],pixels=this.pixels;
  if(!curve){curve=curveTable();srgb=srgbTable();}
  var shape=curve,codes=srgb,own=FINE*(1+3*OUTSET),other=FINE*OUTSET,more=share*gain;
  for(var start=0;start<pixels.length;start+=width){
    for(var i=start,j=0;j<3*width;i++,j+=3){
      sum[j]=gain*r0[i]+more*r1[i];
      sum[j+1]=gain*g0[i]+more*g1[i];
      sum[j+2]=gain*b0[i]+more*b1[i];
    }
    for(i=start,j=0;j<3*width;i++,j+=3){
      var red=shape[bits[j]>>>15],green=shape[bits[j+1]>>>15],blue=shape[bits[j+2]>>>15];
      var from=BELOW+0.5-other*(red+green+blue);
      pixels[i]=255<<24|codes[own*blue+from|0]<<16|codes[own*green+from|0]<<8|
        codes[own*red+from|0];
    }
  }
  this.finish();
};
Drawing.prototype.falseColours=function(layers,share){
  var a=layers[0][3],b=layers[1][3],width=this.picture.width,sum=this.sum,bits=this.bits;
  var pixels=this.pixels;
  if(!this.colours)this.colours=colourTable(this.picture.low,this.picture.high);
  for(var start=0;start<pixels.length;start+=width){
    for(var i=start,j=0;j<width;i++,j++)sum[j]=a[i]+share*b[i];
    for(i=start,j=0;j<width;i++,j++)pixels[i]=this.colours[bits[j]>>>15];
  }
  this.finish();
};

/* ---- the scale of the false colours ---- */
function scaleOf(picture){
  var box=make('div','look-scale'),bar=make('i'),colours=t.bytesOf(t.data.colours),stops=[];
  for(var i=0;i<256;i+=15)stops.push('rgb('+colours[3*i]+','+colours[3*i+1]+','+
    colours[3*i+2]+')');
  bar.style.background='linear-gradient(90deg,'+stops.join(',')+')';
  box.append(bar);
  var span=Math.log(picture.high/picture.low);
  for(var decade=-6;decade<=9;decade++){
    var value=+('1e'+decade),place=Math.log(value/picture.low)/span;
    if(place<-1e-6||place>1+1e-6)continue;
    var tick=make('span',place<0.05?'first':place>0.95?'last':'',String(value));
    tick.style.left=100*place+'%';
    box.append(tick);
  }
  box.append(make('b','','cd/m²'));
  return box;
}

/* ---- one case ---- */
function Look(of,card,frame){
  this.of=of;this.card=card;
  this.picture=t.data.pictures[of.picture];
  this.frame=frame;
  this.inEye=false;this.isDrawn=true;this.at=null;
}
Look.prototype.build=function(){
  var look=this,box=make('div','look'),left=make('div'),right=make('div');
  this.view=make('div','look-view');
  this.canvas=make('canvas');
  this.canvas.tabIndex=0;
  this.canvas.setAttribute('role','img');
  this.canvas.setAttribute('aria-label','What the eye sees; arrow keys move the cross that '+
    'reads luminance');
  this.cross=make('i','look-cross');
  this.cross.hidden=true;
  this.view.append(this.canvas,this.cross);
  this.read=make('div','read');
  this.read.setAttribute('aria-live','polite');
  this.scale=scaleOf(this.picture);
  this.scale.hidden=true;
  this.label=make('b','sub label',this.picture.label||'');
  left.append(make('h3','',this.frame.querySelector('h3').textContent),this.view,this.label,
    this.read,this.scale);
  this.addControls(right);
  this.answer=t.answer();
  right.append(this.answer);
  box.append(left,right);
  this.frame.closest('.figures').insertAdjacentElement('beforebegin',box);
  this.drawing=new Drawing(this.canvas,this.picture);
  this.frame.classList.add('looked');
  this.takeRays();
  ['pointermove','pointerdown'].forEach(function(name){
    look.canvas.addEventListener(name,function(event){look.point(event);});
  });
  this.canvas.addEventListener('pointerleave',function(){look.setAt(null);});
  this.canvas.addEventListener('keydown',function(event){look.key(event);});
};
/* Rays that are drawn over the frame lie over this picture now; on paper over the frame. */
Look.prototype.takeRays=function(){
  var rays=this.frame.querySelector('svg.rays'),home=rays&&rays.parentElement,view=this.view;
  if(!rays)return;
  function take(){view.append(rays);}
  var hash=location.hash;
  take();
  if(/^#[\w-]+$/.test(hash)&&rays.querySelector(hash))location.replace(hash);
  window.addEventListener('beforeprint',function(){home.append(rays);});
  window.addEventListener('afterprint',take);
};
function check(into,title,isOn,changed){
  var label=make('label','tick'),input=make('input');
  input.type='checkbox';
  input.checked=isOn;
  input.addEventListener('change',changed);
  label.append(input,make('span','',title));
  into.append(label);
  return input;
}
function stopWords(v){return (v<0?'−':'+')+Math.abs(v).toFixed(1)+' stops';}
Look.prototype.addControls=function(into){
  var look=this,box=make('div','look-controls'),ticks=make('div','ticks');
  function changed(){look.ask();}
  function level(v){
    return t.figure(100*look.of.level*Math.pow(2,v))+' %';
  }
  this.exposure=t.slider(box,'Exposure',{min:-8,max:8,step:0.1,value:0},stopWords,changed);
  this.brightness=t.slider(box,'Display brightness',{min:-5,max:5,step:0.125,value:0},level,
    changed);
  this.content=check(ticks,'Displays on',true,changed);
  this.colours=check(ticks,'False colours',false,changed);
  if(this.picture.eye)
    this.eye=check(ticks,'Spread as in an eye of '+this.picture.age+' years',false,changed);
  if(this.eye)this.eye.parentElement.title='of what lies in the frame: a sun outside it adds '+
    'nothing';
  box.append(ticks);
  t.button(box,'As it was',function(){
    look.exposure.set(0);look.brightness.set(0);
    look.content.checked=true;look.colours.checked=false;
    if(look.eye)look.eye.checked=false;
    changed();
  });
  into.append(box);
};
Look.prototype.share=function(){
  return this.content.checked?Math.pow(2,this.brightness.get()):0;
};
/* The next picture is drawn once, when the browser is ready for it. */
Look.prototype.ask=function(){
  var look=this;
  if(!this.isDrawn)return;
  this.isDrawn=false;
  requestAnimationFrame(function(){
    var inEye=!!look.eye&&look.eye.checked,id=look.of.picture;
    var isClean=!!look.picture.label&&!inEye&&!look.colours.checked;
    Promise.all([layersOf(id,inEye?IN_EYE:PLAIN),isClean?layersOf(id,CLEAN):null])
      .then(function(layers){
        look.isDrawn=true;
        look.layers=layers[0];
        look.clean=layers[1];
        look.draw();
      });
  });
};
Look.prototype.draw=function(){
  var isFalse=this.colours.checked;
  if(isFalse)this.drawing.falseColours(this.layers,this.share());
  else this.drawing.light(this.clean||this.layers,this.share(),
    0.18/this.picture.grey*Math.pow(2,this.exposure.get()));
  this.scale.hidden=!isFalse;
  this.label.hidden=!this.clean;
  this.exposure.input.disabled=isFalse;
  this.canvas.dataset.drawn=(+this.canvas.dataset.drawn||0)+1;
  this.tell();
  this.setAt(this.at);
};
/* The symbol's contrast at this brightness. */
Look.prototype.tell=function(){
  var of=this.of,share=this.share();
  function ratioAt(share){
    return t.contrast(of.foreground,of.background,share,of.reflected);
  }
  var ratio=ratioAt(share),margin=t.marginOf(of.limit,ratio),verdict=of.verdict;
  if(share!==1)
    verdict=t.verdictAt(verdict,t.marginOf(of.limit,ratioAt(1)),margin);
  this.answer.tell(verdict,ratio,of.limit,[
    ['Symbol',t.figure(of.foreground*share)+' on '+t.figure(of.background*share)+' cd/m²'],
    ['Reflected',t.figure(of.reflected)+' cd/m²']],
    share===1?null:make('p','sub','Judged by its figure, without an interval; the light that '+
      'displays give to the cabin stays as it was.'));
};

/* ---- the value under the cursor ---- */
Look.prototype.point=function(event){
  var box=this.canvas.getBoundingClientRect(),p=this.picture;
  var x=Math.floor((event.clientX-box.left)/box.width*p.width);
  var y=Math.floor((event.clientY-box.top)/box.height*p.height);
  this.setAt(x>=0&&y>=0&&x<p.width&&y<p.height?[x,y]:null);
};
Look.prototype.key=function(event){
  var way={ArrowLeft:[-1,0],ArrowRight:[1,0],ArrowUp:[0,-1],ArrowDown:[0,1]}[event.key];
  var p=this.picture,from=this.at||[p.width>>1,p.height>>1],far=event.shiftKey?20:1;
  if(!way)return;
  event.preventDefault();
  this.setAt([Math.min(Math.max(from[0]+far*way[0],0),p.width-1),
    Math.min(Math.max(from[1]+far*way[1],0),p.height-1)]);
};
Look.prototype.setAt=function(at){
  var p=this.picture;
  this.at=at;
  this.cross.hidden=!at;
  if(!at||!this.layers){this.read.textContent='';return;}
  var i=at[1]*p.width+at[0],own=this.share()*this.layers[1][3][i],rest=this.layers[0][3][i];
  this.cross.style.left=100*(at[0]+0.5)/p.width+'%';
  this.cross.style.top=100*(at[1]+0.5)/p.height+'%';
  this.read.dataset.value=own+rest;
  this.read.textContent=t.figure(own+rest)+' cd/m²'+
    (own>0?': '+t.figure(own)+' of the display, '+t.figure(rest)+' of all else':'');
};

t.data.cases.forEach(function(of){
  var card=document.getElementById(of.card),frame=card&&card.querySelector('figure.frame');
  if(!frame)return;
  t.whenSeen(frame,function(){
    var look=new Look(of,card,frame);
    layersOf(of.picture,PLAIN).then(function(){look.build();look.ask();},function(){});
  });
});
})();
